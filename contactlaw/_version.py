"""The version, for the package and for the files that it writes."""

VERSION = "1.0.0"
