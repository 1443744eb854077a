"""Takes part in a match: as contestant, bot, referee or spectator."""
