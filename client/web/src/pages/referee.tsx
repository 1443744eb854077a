export default function Referee() {
  return <main />;
}
