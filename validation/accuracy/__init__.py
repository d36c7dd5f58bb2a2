"""How right the laws are: beside finite elements, by what is asked of them, by kinds of impacts."""
