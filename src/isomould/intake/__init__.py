"""Part lists of others: JSON, CSV and folders of drawings become instances of the nesting room."""
