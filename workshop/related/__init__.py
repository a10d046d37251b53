"""Reference results that the FMU carries, in data/related/ beside its parameter sets and their manifest.

The folder is extra/org.fmi-standard.fmi-ls-ref/ of the FMU, by the layered standard FMI-LS-REF 1.0.0-beta.1.
"""
