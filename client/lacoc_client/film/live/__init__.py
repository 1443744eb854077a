"""A live stream: the broadcast's page, drawn as the match goes on, with its sound."""
