"""The kind ``mechanism``: a linkage that a pair, a cam or an even shaft drives."""
