// Made by client/web/make_wire.py from the Python structs; not edited by hand.

import type { Phrase } from "../phrase";

export const VERSION = 8;

export interface Team {
  name: string;
  files: string;
  bot: string;
  club: string;
  picture: boolean;
  withdrawn: boolean;
  substitute: string;
  disqualified: boolean;
}

export interface StageSettings {
  games?: number;
  extra_games?: number;
  rounds?: number;
  places?: number;
  confidence?: number;
  groups?: number;
  third_place?: boolean;
  reset?: boolean;
  tie_breaks?: string[];
  options?: Record<string, unknown>;
}

export interface Planned {
  fact: "planned";
  id: string;
  number: number;
  at_ms?: number;
  by?: string;
  stage: string;
  format: string;
  settings?: StageSettings;
  after?: string;
  title?: Record<"en" | "ja", string>;
  draw?: "at-once" | "organiser";
  apart?: boolean;
  met_apart?: boolean;
  break_s?: number;
  final_court?: string;
  final_break_s?: number;
  teams?: number;
  arena?: string;
  arena_settings?: Record<string, unknown>;
  limits?: Record<string, number>;
}

export interface Called {
  fact: "called";
  id: string;
  number: number;
  at_ms?: number;
  by?: string;
  pairing: string;
  game: number;
  teams: [string, string];
  court: string;
}

export interface Stage {
  name: string;
  settings: StageSettings;
  entries: string[];
  drawn: string[][][];
}

export interface Entrant {
  source: "entry";
  team: string;
}

export interface WinnerOf {
  source: "winner";
  pairing: string;
}

export interface LoserOf {
  source: "loser";
  pairing: string;
}

export interface Bye {
  source: "bye";
}

export interface Pairing {
  id: string;
  section: string;
  round: number;
  sources: [Entrant | WinnerOf | LoserOf | Bye, Entrant | WinnerOf | LoserOf | Bye];
  winner_place?: number | null;
  loser_place?: number | null;
  loser_goes_on?: boolean;
  only_if_second_won?: string;
}

export interface CountedGame {
  number: number;
  teams: [string, string];
  scores: [number, number];
  outcome: "left" | "right" | "draw" | "void";
  record?: string;
  court?: string;
  began_ms?: number;
  ruled?: boolean;
  advice?: Phrase[];
  fact: string;
}

export interface ContestMatch {
  pairing: Pairing;
  teams: [string | null, string | null];
  state: "waits" | "open" | "decided" | "off";
  games?: CountedGame[];
  next_game?: number;
  next_seats?: [string, string] | null;
  winner?: string | null;
  loser?: string | null;
  how?: "" | "played" | "extra" | "difference" | "seed" | "walkover" | "bye" | "void";
}

export interface Standing {
  team: string;
  rank: number;
  won: number;
  drawn: number;
  lost: number;
  points: number;
  scored: number;
  conceded: number;
  tie_breaks: number[];
  decided_by: string;
  shares: boolean;
  out: boolean;
}

export interface Table {
  section: string;
  tie_breaks: string[];
  rows: Standing[];
}

export interface StageView {
  plan: Planned;
  stage: Stage;
  matches: ContestMatch[];
  tables: Table[];
  rounds_to_draw: number;
}

export interface Unused {
  fact: string;
  why: Phrase;
}

export interface Decided {
  fact: string;
  at_ms: number;
  what: Phrase;
  pairing: string;
  stage: string;
  reason: string;
  by: string;
}

export interface Rating {
  team: string;
  elo: number;
  interval_elo: number;
  games: number;
}

export interface Coming {
  pairing: string;
  game: number;
  teams: [string, string];
  court: string;
  at_ms: number;
}

export interface Later {
  pairing: string;
  stage: string;
  fixture: Phrase;
  who: [Phrase, Phrase];
  court: string;
  at_ms: number;
}

export interface Day {
  paused: boolean;
  until_ms: number;
  reason: string;
}

export interface Break {
  until_ms: number;
  fixture: Phrase | null;
  who: [Phrase, Phrase] | null;
}

export interface Announced {
  fact: "announced";
  id: string;
  number: number;
  at_ms?: number;
  by?: string;
  text: string;
}

export interface ContestSheet {
  version: number;
  name: string;
  open: boolean;
  closes_ms: number;
  teams: Team[];
  stages: StageView[];
  titles: Record<string, Phrase>;
  fixtures: Record<string, Phrase>;
  planned: Planned[];
  running: Called[];
  coming: Coming[];
  later: Later[];
  reasons: Record<string, Phrase[]>;
  day: Day;
  pause: Break | null;
  announced: Announced | null;
  decided: Decided[];
  ratings: Rating[];
  side_elo: number;
  unused: Unused[];
}
