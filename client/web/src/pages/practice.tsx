export default function Practice() {
  return <main />;
}
