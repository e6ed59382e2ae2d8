"""From trials to paired numbers with intervals, and to verdicts on the paper's claims."""
