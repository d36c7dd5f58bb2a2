"""Accuracy of the laws beside finite elements: errors, acceptance, and scores by kind of impact."""
