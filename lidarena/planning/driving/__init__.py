"""Driving explorers, many worlds at once: what ``frontier`` does step by step, compiled."""
