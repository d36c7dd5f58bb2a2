"""What the demo's scenes have in common; nothing here knows a scene."""
