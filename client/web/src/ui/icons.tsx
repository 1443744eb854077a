/** Small drawings on buttons; the button's label says what they mean. */

const PATHS = {
  panel: "M3 5h18v14H3z M15 5v14 M6 9h6 M6 13h6",
  settings: "M4 7h10 M18 7h2 M4 17h2 M10 17h10 M16 5v4 M8 15v4 M4 12h3 M11 12h9 M9 10v4",
  full: "M4 9V4h5 M20 9V4h-5 M4 15v5h5 M20 15v5h-5",
  play: "M7 4.5v15l12-7.5z",
  pause: "M8 5v14 M16 5v14",
  back: "M15 5l-8 7 8 7 M5 5v14",
  ahead: "M9 5l8 7-8 7 M19 5v14",
  previous: "M12 5l-8 7 8 7 M21 5l-8 7 8 7",
  next: "M12 5l8 7-8 7 M3 5l8 7-8 7",
  hand: "M7 13V6.5a1.5 1.5 0 0 1 3 0V11 M10 11V4.5a1.5 1.5 0 0 1 3 0V11 M13 11V5.5a1.5 1.5 0 0 1 3 0V12 M16 12V8.5a1.5 1.5 0 0 1 3 0V15a6.5 6.5 0 0 1-6.5 6.5c-3 0-4.6-1.2-6-3.6L4 13.6c-.7-1.3 1-2.6 2.2-1.5L8 14",
  copy: "M9 9h11v11H9z M5 15H4V4h11v1",
  screen: "M3 4h18v12H3z M8 21h8 M12 16v5",
  hidden:
    "M3 3l18 18 M10 5.3A9.6 9.6 0 0 1 12 5c5 0 8.5 4 10 7a15 15 0 0 1-3 4 M6.5 7A15 15 0 0 0 2 12c1.5 3 5 7 10 7a9.7 9.7 0 0 0 4.5-1.1 M9.9 10a3 3 0 0 0 4.1 4.2",
  fork: "M4 12h5 M9 12c4 0 4-6 9-6 M15 3l3 3-3 3 M9 12c4 0 4 6 9 6 M15 15l3 3-3 3",
  open: "M3 19V6h6l2 3h10v10z",
  link: "M10 14a4 4 0 0 0 6 .4l3-3a4 4 0 0 0-5.6-5.6L12 7.2 M14 10a4 4 0 0 0-6-.4l-3 3a4 4 0 0 0 5.6 5.6l1.4-1.4",
} as const;

export type IconName = keyof typeof PATHS;

export function Icon({ name }: { name: IconName }) {
  return (
    <svg
      class="icon"
      viewBox="0 0 24 24"
      width="22"
      height="22"
      fill={name === "play" ? "currentColor" : "none"}
      stroke="currentColor"
      stroke-width="2"
      stroke-linecap="round"
      stroke-linejoin="round"
      aria-hidden="true"
    >
      <path d={PATHS[name]} />
    </svg>
  );
}

interface ButtonProps {
  name: IconName;
  label: string;
  /** The tooltip, such as the key for the button; without it, the label. */
  title?: string;
  /** Whether what it opens is open. */
  expanded?: boolean;
  onClick: () => void;
}

/** A button that is nothing but a drawing. */
export function IconButton({ name, label, title = label, expanded, onClick }: ButtonProps) {
  return (
    <button
      class="button"
      type="button"
      aria-expanded={expanded}
      aria-label={label}
      title={title}
      onClick={onClick}
    >
      <Icon name={name} />
    </button>
  );
}
