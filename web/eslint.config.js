// SPDX-License-Identifier: GPL-3.0-or-later
// What `make lint` asks of the page's modules and of its tests: eslint's own recommendations, and lines one can read.
import js from '@eslint/js';
import globals from 'globals';

export default [
  { ignores: ['work/**', 'page/**', 'node_modules/**'] },
  js.configs.recommended,
  {
    languageOptions: { ecmaVersion: 2022, sourceType: 'module', globals: { ...globals.browser, ...globals.node } },
    rules: {
      'max-len': ['error', { code: 120, ignoreUrls: true, ignoreRegExpLiterals: true }],
      'no-var': 'error',
      'prefer-const': 'error',
      'no-unused-vars': ['error', { ignoreRestSiblings: true }],
      eqeqeq: ['error', 'always', { null: 'ignore' }],
    },
  },
];
