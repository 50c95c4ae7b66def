"""The page of a record: its verdict in words, tables and drawings."""
