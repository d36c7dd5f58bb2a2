"""Parts that subcommands share: options, messages, tables, figures, records, engines' lines."""
