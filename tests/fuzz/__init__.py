"""The fuzzer: builds random designs in separate processes and cross-checks the results."""
