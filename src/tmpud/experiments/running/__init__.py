"""Tasks done by supervised worker processes, into a folder that loses nothing."""
