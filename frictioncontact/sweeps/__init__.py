"""Many scenarios on all cores or a Dask cluster."""
