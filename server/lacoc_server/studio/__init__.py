"""The studio: a server that answers requests for trials and for the coach over the network."""
