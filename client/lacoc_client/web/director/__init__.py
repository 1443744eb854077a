"""The director: which courts are shown, and why. All but `programme` is pure.

Several times a second the director takes a *look* at all courts: it notes how each match stands.

`courts` describes a court at one time. `stakes` says how important a match is in its contest.
`moments` finds what is worth seeing. `plan` compares the cuts that can be made in the next seconds.
`director` chooses the court on air, `aside` the one in the second picture. `results` keeps the
newest results. `programme` looks at a gateway's courts, asks the director, and shows what it
chooses.
"""
