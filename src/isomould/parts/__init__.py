"""What is cut, marked and counted: nodes, members, panels."""
