"""What tests share: mechanisms, loads and scenes, random ones, case files, and the independent multibody reference."""

from pathlib import Path

DATA = Path(__file__).parents[1] / "data"
"""Tables of references."""
