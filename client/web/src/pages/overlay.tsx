export default function Overlay() {
  return <main />;
}
