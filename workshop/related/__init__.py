"""Files that the FMU holds beside the model: parameter sets, and experiments with the results they must give.

They stand in extra/org.fmi-standard.fmi-ls-ref/, under the manifest of the layered standard FMI-LS-REF.
"""
