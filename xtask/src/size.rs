//! Flash and RAM of an image, from its ELF program headers, against what the linker script gives; and what takes the RAM.

use std::path::Path;

use object::elf::{FileHeader32, PT_LOAD, STT_OBJECT};
use object::read::elf::{FileHeader, ProgramHeader, Sym};
use object::{LittleEndian, elf};

use crate::args::Arguments;
use crate::firmware::{self, Board};
use crate::{Failure, toolchain};

/// Bytes an image takes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Size {
    /// Code, constants and the initial values of variables.
    pub flash: u64,
    /// Variables.
    pub ram: u64,
    /// What the linker script gives to the stack.
    pub stack: u64,
}

/// The STM32F411CE's memories (RM0383 §2.3), of which `memory.x` keeps the last two flash sectors for the parameters.
const FLASH_ORIGIN: u64 = 0x0800_0000;
const FLASH_IMAGE: u64 = 256 * 1024;
const RAM_ORIGIN: u64 = 0x2000_0000;
const RAM: u64 = 128 * 1024;
/// A variable of at least this many bytes is told by its name.
const LARGE: u64 = 1024;

/// `cargo xtask size`.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let toolchain = toolchain::set_up(arguments.toolchain)?;
    for board in Board::ALL.into_iter().rev() {
        let image = firmware::build(toolchain, board)?;
        report(board, &image)?;
        for (name, bytes) in variables(&image)? {
            println!("{bytes:>8} bytes of RAM: {name}");
        }
    }
    Ok(())
}

/// Prints one image's figures; fails if it does not fit.
pub fn report(board: Board, image: &Path) -> Result<Size, Failure> {
    let size = measure(image)?;
    println!(
        "{}: flash {} of {FLASH_IMAGE} bytes ({:.1} %), variables {} of {} bytes of RAM ({:.1} %) beside a stack of {}",
        board.feature(),
        size.flash,
        percent(size.flash, FLASH_IMAGE),
        size.ram,
        RAM - size.stack,
        percent(size.ram, RAM - size.stack),
        size.stack,
    );
    if size.flash > FLASH_IMAGE || size.ram + size.stack > RAM {
        return Err(format!("{} does not fit on the board", image.display()).into());
    }
    Ok(size)
}

fn percent(part: u64, whole: u64) -> f64 {
    part as f64 / whole as f64 * 100.0
}

/// What is loaded to flash takes its size in the file; what lives in RAM takes its size in memory.
fn measure(image: &Path) -> Result<Size, Failure> {
    let data = read(image)?;
    let stack = stack(image, &data)?;
    let sum = |data: &[u8]| {
        let mut size = Size { stack, ..Size::default() };
        let segments = FileHeader32::<LittleEndian>::parse(data)?.program_headers(LittleEndian, data)?;
        for segment in segments.iter().filter(|segment| segment.p_type(LittleEndian) == PT_LOAD) {
            add(&mut size, segment, LittleEndian);
        }
        Ok::<_, object::read::Error>(size)
    };
    sum(&data).map_err(|error| unreadable(image, &error))
}

/// Bytes of stack, which must end where the RAM begins: what grows beyond that faults, and overwrites nothing.
fn stack(image: &Path, data: &[u8]) -> Result<u64, Failure> {
    let ends = |data: &[u8]| {
        let sections = FileHeader32::<LittleEndian>::parse(data)?.sections(LittleEndian, data)?;
        let symbols = sections.symbols(LittleEndian, data, elf::SHT_SYMTAB)?;
        let value = |wanted: &[u8]| {
            let mut named = symbols.iter().filter(|symbol| symbol.name(LittleEndian, symbols.strings()) == Ok(wanted));
            named.next().map(|symbol| u64::from(symbol.st_value(LittleEndian)))
        };
        Ok::<_, object::read::Error>((value(b"_stack_end"), value(b"_stack_start")))
    };
    match ends(data).map_err(|error| unreadable(image, &error))? {
        (Some(RAM_ORIGIN), Some(start)) if (RAM_ORIGIN..RAM_ORIGIN + RAM).contains(&start) => Ok(start - RAM_ORIGIN),
        _ => Err(format!("{}: the stack is not at the bottom of the RAM: see memory.x", image.display()).into()),
    }
}

/// The large variables, the largest first.
fn variables(image: &Path) -> Result<Vec<(String, u64)>, Failure> {
    let data = read(image)?;
    let list = |data: &[u8]| {
        let header = FileHeader32::<LittleEndian>::parse(data)?;
        let sections = header.sections(LittleEndian, data)?;
        let symbols = sections.symbols(LittleEndian, data, elf::SHT_SYMTAB)?;
        let mut large = Vec::new();
        for symbol in symbols.iter().filter(|symbol| symbol.st_type() == STT_OBJECT) {
            let (at, bytes) = (u64::from(symbol.st_value(LittleEndian)), u64::from(symbol.st_size(LittleEndian)));
            if (RAM_ORIGIN..RAM_ORIGIN + RAM).contains(&at) && bytes >= LARGE {
                let name = String::from_utf8_lossy(symbol.name(LittleEndian, symbols.strings())?);
                large.push((format!("{:#}", rustc_demangle::demangle(&name)), bytes));
            }
        }
        large.sort_by_key(|(_, bytes)| std::cmp::Reverse(*bytes));
        Ok::<_, object::read::Error>(large)
    };
    list(&data).map_err(|error| unreadable(image, &error))
}

fn read(image: &Path) -> Result<Vec<u8>, Failure> {
    std::fs::read(image).map_err(|error| unreadable(image, &error))
}

fn unreadable(image: &Path, error: &dyn std::fmt::Display) -> Failure {
    format!("{} cannot be read: {error}", image.display()).into()
}

fn add(size: &mut Size, segment: &elf::ProgramHeader32<LittleEndian>, endian: LittleEndian) {
    let (loaded, lives) = (u64::from(segment.p_paddr(endian)), u64::from(segment.p_vaddr(endian)));
    if (FLASH_ORIGIN..RAM_ORIGIN).contains(&loaded) {
        size.flash += u64::from(segment.p_filesz(endian));
    }
    if lives >= RAM_ORIGIN {
        size.ram += u64::from(segment.p_memsz(endian));
    }
}
