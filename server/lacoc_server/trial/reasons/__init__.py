"""Reasons: why a robot walks as it does, and which change of the table would repair it.

`form` has a key's table and what each number's partner does. `repairs` lists the changes that would
make a table whole, `shared` those of faults that all legs share, `reach` those of legs that never
reach the floor, and `likely` weighs them without physics. `explain` tells the likely one and what
the trial showed, `legs` what one leg does otherwise, `balance` when the robot does not stand on its
feet. The coach tries the same repairs in physics.
"""
