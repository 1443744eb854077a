"""The director: which courts are shown, and why. Pure: numbers in, values out.

`courts` describes a court at one time, `stakes` weighs what a match is in its contest, `moments`
finds what is worth seeing, `plan` compares which cuts to make in the next seconds, `director`
chooses the court on air, `aside` the one in the second picture, and `results` keeps the newest
results. The gateway looks at its courts and asks the director (`gateway/programme`).
"""
