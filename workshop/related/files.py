"""Writes the folder extra/org.fmi-standard.fmi-ls-ref/ of the FMU.

    python -m workshop.related.files FOLDER

Parameter sets are those of the System Structure Parameterization standard (SSP 1.0), the manifest that of
FMI-LS-REF 1.0.0-alpha.1. The build makes them.
"""

import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from xml.etree import ElementTree

from workshop.presets import Preset, presets
from workshop.related.experiments import Experiment, experiments

STANDARD = "org.fmi-standard.fmi-ls-ref"
FOLDER = f"extra/{STANDARD}"
MANIFEST = "fmi-ls-manifest.xml"
EXPERIMENTS = "validation.exp"
CHECKSUMS = "sha256sums.txt"  # added by workshop.packing.archive, which knows the other files
SSV = "http://ssp-standard.org/SSP1/SystemStructureParameterValues"
LAYERED = "http://fmi-standard.org/fmi-ls-manifest"

ElementTree.register_namespace("ssv", SSV)
ElementTree.register_namespace("fmi-ls", LAYERED)


def files() -> dict[str, bytes]:
    """Name in the folder -> content."""
    sets, runs = presets(), experiments()
    return {
        MANIFEST: manifest(sets, runs),
        EXPERIMENTS: experiment_file(runs),
        **{f"{preset.id}.ssv": parameter_set(preset.title, preset.values) for preset in sets},
        **{run.result.name: run.result.read_bytes() for run in runs},
    }


def parameter_set(name: str, values: Mapping[str, float | str]) -> bytes:
    root = ElementTree.Element(f"{{{SSV}}}ParameterSet", version="1.0", name=name)
    parameters = ElementTree.SubElement(root, f"{{{SSV}}}Parameters")
    for variable, value in values.items():
        parameter = ElementTree.SubElement(parameters, f"{{{SSV}}}Parameter", name=variable)
        kind = "Enumeration" if isinstance(value, str) else "Real"
        ElementTree.SubElement(parameter, f"{{{SSV}}}{kind}", value=str(value))
    return _bytes(root)


def experiment_file(runs: Sequence[Experiment]) -> bytes:
    """Experiments as FMI-LS-REF 1.0.0-alpha.1 describes them."""
    root = ElementTree.Element(
        "Experiments",
        name="Validation",
        description="Results of an independent reference, to hold the FMU against",
    )
    for run in runs:
        attributes = {
            "name": run.name,
            "description": run.description,
            "startTime": "0",
            "stopTime": str(run.stop),
            "tolerance": str(run.tolerance),
            "stepSize": str(run.step),
        }
        element = ElementTree.SubElement(root, "Experiment", attributes)
        if run.values:
            ElementTree.SubElement(element, "Parameters", source=f"{run.name}.ssv")
        ElementTree.SubElement(element, "References", type="text/csv", source=run.result.name)
    return _bytes(root)


def manifest(sets: Sequence[Preset], runs: Sequence[Experiment]) -> bytes:
    """One Related element for each file beside the manifest."""
    attributes = {
        f"{{{LAYERED}}}fmi-ls-name": STANDARD,
        f"{{{LAYERED}}}fmi-ls-version": "1.0.0-alpha.1",
        f"{{{LAYERED}}}fmi-ls-description": (
            "Layered Standard providing information on related files included in an FMU."
        ),
    }
    root = ElementTree.Element("fmiReferences", attributes)

    def related(source: str, kind: str, role: str, text: str) -> None:
        ElementTree.SubElement(root, "Related", type=kind, source=source, role=role, description=text)

    for run in runs:
        related(run.result.name, "text/csv", "result", f"{run.description}: by an independent reference")
    related(
        EXPERIMENTS,
        "application/x-ma-ls-experiments",
        "experiment/validation",
        "Runs whose results the FMU must give within solver.tolerance",
    )
    related(CHECKSUMS, "text/plain", "meta-data", "SHA-256 of every other file of the FMU, as it was packed")
    for preset in sets:
        related(f"{preset.id}.ssv", "application/x-ssp-parameter-set", "parameter", preset.title)
    return _bytes(root)


def _bytes(root: ElementTree.Element) -> bytes:
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="utf-8", xml_declaration=True) + b"\n"


def write(folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    wanted = files()
    for path in folder.iterdir():
        if path.name not in wanted:
            path.unlink()
    for name, content in wanted.items():
        (folder / name).write_bytes(content)


if __name__ == "__main__":
    try:
        write(Path(sys.argv[1]))
    except (OSError, ValueError) as error:
        sys.exit(f"error: {error}")
