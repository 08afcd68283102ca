// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

// The splat: the bytes of a compressed .ply, and its parts as they lie in the file.

/** Returns the bytes of the base64 text in the page, and frees the text. */
function embeddedBytes() {
  const parts = [...document.querySelectorAll('script.splat')].map(element => {
    const text = atob(element.textContent.trim());
    element.remove();
    const bytes = new Uint8Array(text.length);
    for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
    return bytes;
  });
  const all = new Uint8Array(parts.reduce((sum, part) => sum + part.length, 0));
  let at = 0;
  for (const part of parts) { all.set(part, at); at += part.length; }
  return all;
}

function parsePly(bytes) {
  const marker = 'end_header\n', head = new TextDecoder('latin1').decode(bytes.subarray(0, 8192));
  const end = head.indexOf(marker);
  if (end < 0) throw new Error('the embedded scene has no header');
  const elements = {};
  let at = end + marker.length, element = null;
  for (const line of head.slice(0, end).split('\n')) {
    const words = line.trim().split(/\s+/);
    if (words[0] === 'element') element = elements[words[1]] = { count: +words[2], properties: 0 };
    if (words[0] === 'property') element.properties++;
  }
  const take = (name, size) => {
    const { count, properties } = elements[name], begin = at;
    at += count * properties * size;
    if (at > bytes.length) throw new Error('the embedded scene is truncated');
    return bytes.slice(begin, at);  // a copy, which is aligned
  };
  const chunks = new Float32Array(take('chunk', 4).buffer), packed = new Uint32Array(take('vertex', 4).buffer);
  const perGaussian = elements.sh ? elements.sh.properties : 0;
  return { count: elements.vertex.count, chunks, perChunk: elements.chunk.properties, packed,
           harmonics: elements.sh ? take('sh', 1) : null, perGaussian,
           degree: { 0: 0, 9: 1, 24: 2, 45: 3 }[perGaussian] };
}

/** Returns the positions of all Gaussians. */
function positionsOf({ count, chunks, perChunk, packed }) {
  const positions = new Float32Array(3 * count);
  for (let i = 0; i < count; i++) {
    const c = (i >> 8) * perChunk, p = packed[4 * i];
    const x = (p >>> 21) / 2047, y = (p >>> 11 & 1023) / 1023, z = (p & 2047) / 2047;
    positions[3 * i] = chunks[c] + x * (chunks[c + 3] - chunks[c]);
    positions[3 * i + 1] = chunks[c + 1] + y * (chunks[c + 4] - chunks[c + 1]);
    positions[3 * i + 2] = chunks[c + 2] + z * (chunks[c + 5] - chunks[c + 2]);
  }
  return positions;
}
