"""The studio: answers requests for trials and for the coach, over the network."""
