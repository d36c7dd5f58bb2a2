"""The computations behind the pages of this folder."""
