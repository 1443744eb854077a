/** The picture that a team gives of itself: made small here, and kept for this tab. */

import { fromBase64, toBase64 } from "../../core/base64";
import { remembered } from "../../core/settings";
import { tab } from "../../core/storage";
import type { SentFile } from "../../core/wire";

/** The office makes it smaller still (team_picture.py). */
const SIDE_PX = 256;

interface Kept {
  name: string;
  base64: string;
}

const kept = remembered<Kept | null>("picture", null, tab);

export function isPicture(file: File): boolean {
  return file.type.startsWith("image/");
}

/** Keep the middle of a picture; rejects if the browser can't read it. */
export async function choosePicture(file: File): Promise<void> {
  const found = await createImageBitmap(file);
  const side = Math.min(found.width, found.height);
  const canvas = new OffscreenCanvas(SIDE_PX, SIDE_PX);
  const [left, top] = [(found.width - side) / 2, (found.height - side) / 2];
  canvas.getContext("2d")!.drawImage(found, left, top, side, side, 0, 0, SIDE_PX, SIDE_PX);
  const blob = await canvas.convertToBlob({ type: "image/webp", quality: 0.8 });
  kept.value = { name: file.name, base64: toBase64(new Uint8Array(await blob.arrayBuffer())) };
}

export function forgetPicture(): void {
  kept.value = null;
}

/** The address of the picture for an image; "": none was chosen. */
export function chosenPictureUrl(): string {
  return kept.value ? `data:image/webp;base64,${kept.value.base64}` : "";
}

/** The picture as it is handed in; null: none was chosen. */
export function chosenPicture(): SentFile | null {
  const { name = "", base64 = "" } = kept.peek() ?? {};
  return base64 ? { name, data: fromBase64(base64) } : null;
}
