"""Many scenes on all cores or a Dask cluster."""

from importlib.util import find_spec

if find_spec("pyarrow") is None:
    raise ModuleNotFoundError("sweeps need pyarrow: pip install 'frictioncontact[sweep]'", name="pyarrow")
