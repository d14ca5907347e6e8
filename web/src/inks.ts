/// x, y and z have the same colour everywhere; other channels take turns.
export function channelInk(name: string, index: number): string {
  const axis = /(?:^|[^a-z])([xyz])(?:$|[^a-z])|([xyz])\d*$/i.exec(name);
  const letter = (axis?.[1] ?? axis?.[2] ?? "").toLowerCase();
  const inks: { [axis: string]: string } = { x: "blue", y: "orange", z: "green" };
  return inks[letter] ?? ["blue", "orange", "green"][index % 3] ?? "blue";
}
