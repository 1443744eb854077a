/** A phrase that programs send: a code and its values. `i18n/render.ts` puts it into words. */

export interface Phrase {
  code: string;
  values?: Record<string, Value>;
}

export type Value = string | number | bigint | boolean | null | Phrase | Value[];
