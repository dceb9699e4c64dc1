"""`python -m isomould`: the command line."""

from isomould.cli import main

if __name__ == "__main__":
    main()
