"""Experiments: many trials run, judged and reported; ``kinds`` joins the parts.

``running`` does tasks and keeps their results, ``worlds`` learns the abstract simulation's models, ``trials`` says what
is driven, ``statistics`` and ``reports`` what came out, ``calibration`` how true Safe is.
"""
