"""Adapters: one folder per engine, each a translation of the engine's collision and back.

`record` has the impacts that they all write, `needs` what they ask of a model.

An engine is imported when its adapter is used, never by ``import contactlaw``.
"""
