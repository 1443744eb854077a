/** What can be done on this page. It is not the same wherever the page is opened. */

export interface Can {
  /** Open and save the files of a folder; else they are only dropped and downloaded. */
  save: boolean;
  /** Ask the coach. */
  coach: boolean;
  /** Work on the six phases. */
  learn: boolean;
}

/** On one's own machine. */
export const ALL: Can = { save: true, coach: true, learn: true };
