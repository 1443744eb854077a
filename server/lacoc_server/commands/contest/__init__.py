"""`lacoc contest`: from the contest file to standings that anybody can check."""
