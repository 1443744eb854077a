"""The director: which court is on air, and why. Pure: numbers in, values out.

`courts` describes a court at one time, `stakes` weighs what a match is in its contest, `moments`
finds what is worth seeing, `plan` compares which cuts to make in the next seconds, `director`
chooses the court, and `results` keeps the newest results. The gateway looks at its courts and asks
the director (`gateway/programme`).
"""
