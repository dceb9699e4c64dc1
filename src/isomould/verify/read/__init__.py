"""The verifier's own readers: files to frozen values, `Unreadable` for anything that is not right."""
