export default function Play() {
  return <main />;
}
