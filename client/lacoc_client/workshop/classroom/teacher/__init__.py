"""The teacher's page of a class: the requests that it sends, and the messages that it gets."""
