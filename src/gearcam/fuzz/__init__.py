"""The fuzzer: random designs are built in processes of their own, and what is made doubted."""
