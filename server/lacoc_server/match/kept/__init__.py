"""What a match keeps of itself: the ticks that were judged, and its whole state as bytes."""
