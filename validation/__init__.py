"""Comparisons of contactlaw with what could disagree, and its benchmarks."""
