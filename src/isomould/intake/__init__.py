"""Part lists of others: JSON, CSV and folders of drawings become parts with their stock."""
