"""Panels on stock sheets or in blanks to order, members on bars, and the checkers that prove them."""
