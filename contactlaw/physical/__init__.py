"""Materials, pairs and impacts in SI units, and where the model may be trusted."""
