"""The version, for the package and for the files that it writes."""

VERSION = "0.3.0"
