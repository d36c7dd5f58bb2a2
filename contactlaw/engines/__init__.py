"""Adapters to simulation engines, one folder per engine.

`record` defines the impacts that all adapters write, `needs` what they require of a model.

An engine is imported when its adapter is used, never by ``import contactlaw``.
"""
