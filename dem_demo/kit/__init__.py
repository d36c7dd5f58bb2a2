"""What the demo's scenes have in common; no file here imports a scene."""
