"""What the command line is made of: options, wording, sheets, figures, records, lines."""
