// Holds a glTF file against the Khronos validator: node test/validate_glb.mjs FILE...; exits with 1 on errors or warnings.
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';

const validator = createRequire(import.meta.url)('gltf-validator');
let faults = 0;
for (const file of process.argv.slice(2)) {
    const report = await validator.validateBytes(new Uint8Array(readFileSync(file)), { maxIssues: 100 });
    const { numErrors, numWarnings, messages } = report.issues;
    faults += numErrors + numWarnings;
    console.log(`${file}: ${report.info.totalTriangleCount} triangles, ${numErrors} errors, ${numWarnings} warnings`);
    for (const message of messages.filter((m) => m.severity < 2)) console.log(`  ${message.pointer}: ${message.code}: ${message.message}`);
}
process.exitCode = faults > 0 ? 1 : 0;
