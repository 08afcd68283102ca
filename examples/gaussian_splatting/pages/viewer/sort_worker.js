// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/** The code of the worker, which sorts Gaussians from back to front by 16 bits of their depth. */
function sortWorker() {
  const keys = 65536, counts = new Uint32Array(keys + 1);
  let positions, depths, bits, keyOf;
  /** Sets `depths` and returns the range of their bits, in which depths in front have their order. */
  function project([x, y, z], offset, near) {
    let least = 0xffffffff, most = 0;
    for (let i = 0, k = 0; i < depths.length; i++, k += 3) {
      const depth = x * positions[k] + y * positions[k + 1] + z * positions[k + 2] - offset;
      depths[i] = depth > near ? depth : 0;
      const b = bits[i];
      if (b === 0) continue;
      if (b < least) least = b;
      if (b > most) most = b;
    }
    return [least, Math.max(most - least, 1)];
  }
  function sorted(forward, offset, near) {
    const [least, range] = project(forward, offset, near), scale = (keys - 1) / range;
    counts.fill(0);
    for (let i = 0; i < bits.length; i++) {
      if (bits[i] === 0) continue;
      keyOf[i] = keys - 1 - ((bits[i] - least) * scale | 0);
      counts[keyOf[i] + 1]++;
    }
    for (let k = 0; k < keys; k++) counts[k + 1] += counts[k];
    const order = new Uint32Array(counts[keys]);
    for (let i = 0; i < bits.length; i++) if (bits[i] !== 0) order[counts[keyOf[i]]++] = i;
    return order;
  }
  onmessage = ({ data }) => {
    if (data.positions) {
      positions = data.positions;
      depths = new Float32Array(positions.length / 3);
      bits = new Uint32Array(depths.buffer);
      keyOf = new Uint16Array(depths.length);
      return;
    }
    const order = sorted(data.forward, data.offset, data.near);
    postMessage({ order, version: data.version }, [order.buffer]);
  };
}
