"""Reasons: why a robot walks as it does, and which change of the table would repair it.

`form` compares the numbers of each leg with those of its partner, the leg opposite to it. Three
modules list changes that would repair a table: `repairs` where only a part is wrong, `shared` where
all legs have the same fault, `reach` where legs never reach the floor. `likely` weighs these
repairs without physics. `explain` makes sentences of the likely mistake and of what the trial
showed: `legs` finds a leg that differs from the others, `balance` a robot that does not stand on
its feet. The coach tries the same repairs in physics.
"""
