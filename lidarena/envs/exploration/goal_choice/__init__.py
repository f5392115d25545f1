"""Choosing where to explore next: exploration worlds whose steps last until the next choice is due."""
