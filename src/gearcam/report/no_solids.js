// A page without solids.
const solids = { move() {}, renew() {}, from() {} };
