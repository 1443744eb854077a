/** Pictures that a gateway made, such as QR codes. */

/** An SVG picture as the address of an image. */
export function pictureUrl(svg: string): string {
  return `data:image/svg+xml;utf8,${encodeURIComponent(svg)}`;
}
