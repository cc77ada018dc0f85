"""The stages of a control tick, each of which joins the files of some rooms."""
