"""Accuracy of `contactlaw.fit`, with synthetic data and with finite elements.

``python -m validation.inverse [coverage|elements|contact_time|model]``.
"""
