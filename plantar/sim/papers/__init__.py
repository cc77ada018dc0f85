"""The papers that this project follows: what each of them sets, and its experiments as they are run here."""
