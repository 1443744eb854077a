// Made by client/web/make_wire.py; not edited by hand.

export const DEEPEST = 5;
export const LONGEST_LIST = 100;
export const LONGEST_TEXT = 2000;
export const LARGEST = 1e+15;
export const DECIMALS = 6;
