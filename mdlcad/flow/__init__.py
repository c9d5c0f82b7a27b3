"""The pipeline: a flat list of steps, the folder they fill, and the sign-off of a finished folder."""
