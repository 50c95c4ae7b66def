"""The report: one self-contained page from the tables and figures that the pipeline wrote."""
