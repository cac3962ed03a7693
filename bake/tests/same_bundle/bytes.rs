//! Numbers as words or as bytes.

/// How numbers are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Numbers {
    Ascii,
    Little,
    Big,
}

/// A file in the making.
pub struct Bytes {
    bytes: Vec<u8>,
    numbers: Numbers,
}

impl Bytes {
    pub fn new(numbers: Numbers) -> Self {
        Self {
            bytes: Vec::new(),
            numbers,
        }
    }

    pub fn is_text(&self) -> bool {
        self.numbers == Numbers::Ascii
    }

    pub fn finish(self) -> Vec<u8> {
        self.bytes
    }

    pub fn text(&mut self, text: &str) {
        self.bytes.extend(text.bytes());
    }

    /// Ends a line of words; bytes have no lines.
    pub fn end_line(&mut self) {
        if self.is_text() {
            self.text("\n");
        }
    }

    /// One number: its word, or its bytes, which are given from the least significant.
    fn number(&mut self, word: &str, little: &[u8]) {
        match self.numbers {
            Numbers::Ascii => self.text(&format!("{word} ")),
            Numbers::Little => self.bytes.extend(little),
            Numbers::Big => self.bytes.extend(little.iter().rev()),
        }
    }

    pub fn byte(&mut self, value: u8) {
        self.number(&value.to_string(), &[value]);
    }

    pub fn int(&mut self, value: i32) {
        self.number(&value.to_string(), &value.to_le_bytes());
    }

    pub fn ints(&mut self, values: &[i32]) {
        values.iter().for_each(|value| self.int(*value));
    }

    /// Numbers of 64 bits.
    pub fn sizes(&mut self, values: &[u64]) {
        for value in values {
            self.number(&value.to_string(), &value.to_le_bytes());
        }
    }

    pub fn reals(&mut self, values: &[f64]) {
        for value in values {
            self.number(&value.to_string(), &value.to_le_bytes());
        }
    }

    pub fn singles(&mut self, values: &[f64]) {
        for value in values {
            let single = *value as f32;
            assert_eq!(
                f64::from(single),
                *value,
                "single precision holds the number"
            );
            self.number(&value.to_string(), &single.to_le_bytes());
        }
    }
}
