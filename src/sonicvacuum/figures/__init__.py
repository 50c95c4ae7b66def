"""Pictures of a verdict, drawn from the tables that `discover` writes, and those that matplotlib draws."""
