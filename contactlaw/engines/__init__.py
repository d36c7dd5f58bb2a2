"""Adapters: one module per engine, each a translation of the engine's collision and back.

An engine is imported when its adapter is used, never by ``import contactlaw``.
"""
