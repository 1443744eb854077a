/** The colours in which people at a table are shown. */

/** As many as there are in people.css. */
export const COLOURS = 6;
