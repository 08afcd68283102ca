// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
//
// Writes the Gaussians of an SPZ file, as @adobe/spz reads them with y down, as CSV:
//     node spz_to_csv.mjs in.spz out.csv
import { readFileSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { pathToFileURL } from 'node:url';

const require = createRequire(process.cwd() + '/');
const { default: createModule } = await import(pathToFileURL(require.resolve('@adobe/spz')).href);
const spz = await createModule();
const cloud = await spz.loadSpzFromBuffer(readFileSync(process.argv[2]), { to: spz.CoordinateSystem.RDF });

const coefficients = [0, 3, 8, 15, 24][cloud.shDegree];
const names = ['x', 'y', 'z', 'scale_0', 'scale_1', 'scale_2', 'rot_0', 'rot_1', 'rot_2', 'rot_3', 'opacity',
    'f_dc_0', 'f_dc_1', 'f_dc_2'];
for (let k = 0; k < 3 * coefficients; ++k) names.push(`f_rest_${k}`);
const lines = [names.join(',')];
for (let i = 0; i < cloud.numPoints; ++i) {
    const of = (array, width) => Array.from(array.subarray(width * i, width * (i + 1)));
    const [x, y, z, w] = of(cloud.rotations, 4);
    const sh = of(cloud.sh, 3 * coefficients);  // coefficient by coefficient; the columns go by channel
    const rest = [];
    for (let channel = 0; channel < 3; ++channel)
        for (let k = 0; k < coefficients; ++k) rest.push(sh[3 * k + channel]);
    lines.push([...of(cloud.positions, 3), ...of(cloud.scales, 3), w, x, y, z, cloud.alphas[i],
        ...of(cloud.colors, 3), ...rest].join(','));
}
writeFileSync(process.argv[3], lines.join('\n') + '\n');
