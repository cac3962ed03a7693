//! The sizes of a running image's sections, from the linker's own symbols.

unsafe extern "C" {
    static __vector_table: u8;
    static __erodata: u8;
    static __sdata: u8;
    static __edata: u8;
    static __sbss: u8;
    static __ebss: u8;
    static __suninit: u8;
    static __euninit: u8;
}

/// Bytes of flash and RAM that an image takes, its stack aside.
#[derive(Clone, Copy, Debug, PartialEq, Eq, defmt::Format)]
pub struct SectionBytes {
    /// Vector table, code, constants and the first values of the statics.
    pub flash: usize,
    /// Statics of all kinds.
    pub ram: usize,
}

/// Reads the sizes of this image.
#[must_use]
pub fn section_bytes() -> SectionBytes {
    let data = (&raw const __edata as usize) - (&raw const __sdata as usize);
    let zeroed = (&raw const __ebss as usize) - (&raw const __sbss as usize);
    let untouched = (&raw const __euninit as usize) - (&raw const __suninit as usize);
    let code = (&raw const __erodata as usize) - (&raw const __vector_table as usize);
    SectionBytes {
        flash: code + data,
        ram: data + zeroed + untouched,
    }
}
