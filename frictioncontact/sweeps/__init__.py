"""Many scenes on all cores or a Dask cluster."""
