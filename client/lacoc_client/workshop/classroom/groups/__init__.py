"""Groups of a class: two to four students at one table (workshop 4-2)."""
