"""Writing a delivery: every file of the folder, from finished values (deliverables, Folder)."""
