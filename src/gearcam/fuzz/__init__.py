"""The fuzzer: random designs are built in processes of their own, and what comes of them doubted."""
