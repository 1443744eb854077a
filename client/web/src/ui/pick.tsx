/** Picks gait and robot files of this machine. */

interface Props {
  /** Id of the input, for the label that opens it. */
  id: string;
  take: (files: Iterable<File>) => Promise<void>;
}

/** The hidden input behind a label or button; the same file can be picked again. */
export function PickFiles({ id, take }: Props) {
  return (
    <input
      id={id}
      class="hidden-text"
      type="file"
      multiple
      accept=".txt,.xlsx,.toml,.tsv,.csv"
      onChange={(event) => {
        const picked = event.currentTarget;
        void take([...(picked.files ?? [])]).then(() => {
          picked.value = ""; // the same file again, after it was mended
        });
      }}
    />
  );
}
