//! The ring between the interrupt of the serial port and the control loop.

use core::sync::atomic::{AtomicU32, Ordering};

use heapless::spsc::{Consumer, Producer, Queue};

/// Slots of the ring; one stays free. At a million baud 20 ms bring 2000 bytes.
pub const RING_BYTES: usize = 2048;

/// Bytes that have arrived and were not looked at.
#[derive(Default)]
pub struct Ring {
    queue: Queue<u8, RING_BYTES>,
    lost: AtomicU32,
}

impl Ring {
    /// An empty ring.
    #[must_use]
    pub const fn new() -> Self {
        Ring {
            queue: Queue::new(),
            lost: AtomicU32::new(0),
        }
    }

    /// The two ends: one for the interrupt, one for the loop.
    pub fn split(&mut self) -> (Filler<'_>, Drain<'_>) {
        let lost = &self.lost;
        let (producer, consumer) = self.queue.split();
        (Filler { producer, lost }, Drain { consumer, lost })
    }
}

/// The end that the interrupt fills.
pub struct Filler<'a> {
    producer: Producer<'a, u8>,
    lost: &'a AtomicU32,
}

impl Filler<'_> {
    /// Puts a byte in. A full ring loses it and counts it.
    pub fn put(&mut self, byte: u8) {
        if self.producer.enqueue(byte).is_err() {
            // Only this end writes the count: a load and a store are enough.
            let lost = self.lost.load(Ordering::Relaxed).saturating_add(1);
            self.lost.store(lost, Ordering::Relaxed);
        }
    }
}

/// The end that the loop empties.
pub struct Drain<'a> {
    consumer: Consumer<'a, u8>,
    lost: &'a AtomicU32,
}

impl Drain<'_> {
    /// The oldest byte.
    pub fn take(&mut self) -> Option<u8> {
        self.consumer.dequeue()
    }

    /// How many bytes the ring has lost so far.
    #[must_use]
    pub fn lost(&self) -> u32 {
        self.lost.load(Ordering::Relaxed)
    }
}
