"""What is driven: the paper's table and figure, and any grid of trials."""
