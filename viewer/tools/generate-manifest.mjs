// Makes src/core/generated/ from schema/manifest.schema.json: the manifest's type, and a validator that needs no library at run time.
// The C++ writer is tested against the same schema, so that both sides keep one contract.
import fs from 'node:fs';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import Ajv from 'ajv';
import standaloneCode from 'ajv/dist/standalone/index.js';
import { compile } from 'json-schema-to-typescript';

const here = path.dirname(fileURLToPath(import.meta.url));
const schemaPath = path.join(here, '../../schema/manifest.schema.json');
const outFolder = path.join(here, '../src/core/generated');
const schema = JSON.parse(fs.readFileSync(schemaPath, 'utf8'));

const ajv = new Ajv.default({ allErrors: true, strict: false, validateFormats: false, code: { source: true, esm: true, lines: true } });
const validatorSource = standaloneCode.default(ajv, ajv.compile(schema));
if (validatorSource.includes('require(')) throw new Error(`${schemaPath}: uses a keyword whose validator needs Ajv at run time`);

const types = await compile({ ...schema, title: 'Manifest' }, 'Manifest', {
  bannerComment: '// Generated from schema/manifest.schema.json by tools/generate-manifest.mjs. Do not edit.',
  additionalProperties: false,
  ignoreMinAndMaxItems: false,
  unknownAny: true,
});

fs.mkdirSync(outFolder, { recursive: true });
fs.writeFileSync(path.join(outFolder, 'manifest.ts'), types);
fs.writeFileSync(path.join(outFolder, 'validate_manifest.js'), `// Generated from schema/manifest.schema.json. Do not edit.\n${validatorSource}`);
fs.writeFileSync(
  path.join(outFolder, 'validate_manifest.d.ts'),
  `// Generated beside validate_manifest.js.
export interface SchemaError { instancePath: string; message?: string }
declare const validate: { (data: unknown): boolean; errors?: SchemaError[] | null };
export default validate;
`,
);
