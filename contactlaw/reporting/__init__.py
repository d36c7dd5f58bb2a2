"""The report of a run: summary, figures and a page, of the demo's scenes and of users' own runs."""
