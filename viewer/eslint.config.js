import tseslint from 'typescript-eslint';

// Texts of recordings are shown as text, never as markup.
const noMarkup = ['innerHTML', 'outerHTML', 'insertAdjacentHTML', 'document.write'].map((name) => ({
  selector: `MemberExpression[property.name='${name.split('.').pop()}']`,
  message: 'Use textContent: what a recording says is text, never markup.',
}));

export default tseslint.config(
  { ignores: ['dist', 'node_modules'] },
  {
    files: ['src/**/*.ts', 'test/**/*.ts', 'test-lab/**/*.ts', '*.ts'],
    extends: [...tseslint.configs.strictTypeChecked, ...tseslint.configs.stylisticTypeChecked],
    languageOptions: { parserOptions: { projectService: true } },
    rules: {
      'no-restricted-syntax': ['error', ...noMarkup],
      'max-len': ['error', { code: 110 }],
      'max-lines': ['error', 400],
      '@typescript-eslint/no-non-null-assertion': 'off',
      // `() => this.draw()` is one action, as readable as a block of three lines.
      '@typescript-eslint/no-confusing-void-expression': ['error', { ignoreArrowShorthand: true }],
      '@typescript-eslint/restrict-template-expressions': ['error', { allowNumber: true }],
    },
  },
);
