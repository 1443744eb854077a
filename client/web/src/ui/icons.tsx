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
