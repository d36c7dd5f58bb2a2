"""Records of impacts: their columns, and one self-describing file that every engine writes."""
