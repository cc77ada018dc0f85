"""Mountable tactile shoes: from a foot's geometry to a printable part and its layout file."""
