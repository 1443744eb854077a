"""The director: which court is on air, and why. Pure: numbers in, values out.

`courts` says what a court is at one time, `stakes` what a match is worth, `moments` finds what is
worth seeing, `plan` compares ways through what comes, and `director` chooses. The gateway looks at
its courts and asks (`gateway/programme`).
"""
