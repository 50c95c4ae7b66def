"""Pictures of a verdict, drawn from the tables that `discover` writes; they need matplotlib."""
