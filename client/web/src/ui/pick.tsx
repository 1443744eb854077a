/** Picks gait and robot files of this machine. */

interface Props {
  /** Id of the input, for the label that opens it. */
  id: string;
  take: (files: Iterable<File>) => Promise<void>;
  /** What else can be picked, as `accept` of an input has it. */
  more?: string;
}

/** The hidden input behind a label or button; the same file can be picked again. */
export function PickFiles({ id, take, more = "" }: Props) {
  return (
    <input
      id={id}
      class="hidden-text"
      type="file"
      multiple
      accept={`.txt,.xlsx,.toml,.tsv,.csv${more}`}
      onChange={(event) => {
        const picked = event.currentTarget;
        void take([...(picked.files ?? [])]).then(() => {
          picked.value = ""; // the same file again, after it was mended
        });
      }}
    />
  );
}
