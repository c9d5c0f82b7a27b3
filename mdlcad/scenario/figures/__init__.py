"""Pictures of a run in a world. No state of matplotlib's own is touched: no pyplot, figures are plain objects."""
