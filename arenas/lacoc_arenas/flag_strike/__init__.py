"""Flag-Strike (workshop 5-2, rules 6): robots take the four corners and strike down flags."""
