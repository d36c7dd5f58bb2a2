"""What `contactlaw.fit` finds, judged: by synthetic data, and by finite elements.

``python -m validation.inverse [coverage|elements|contact_time|model]``.
"""
